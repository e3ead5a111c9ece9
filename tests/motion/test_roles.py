"""Which joint plays which role in the namings that people's files have."""

import itertools
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onbeat.errors import BodyError
from onbeat.formats import read_motion
from onbeat.formats.conventions import up_vectors
from onbeat.motion import Body, Skeleton
from onbeat.motion.limbs import LIMBS, limb_roles
from onbeat.motion.role_names import NEEDED, ROLES, parts_of, usual_names
from onbeat.motion.roles import find_roles, role_report
from onbeat.motion.tree import Tree
from onbeat.motion.unitree_g1 import G1
from persons import along_local_axes, depth_first, person, swinging

# For each naming: the marks of left and right; the joints, a chain in a line from a joint that is there already, ``#``
# for the side and ``=`` before a joint at its parent's place; the joint of each role, sided ones with ``#`` again.
NAMINGS = {
    "Acclaim of CMU": """l r
        root > #hipjoint > #femur > #tibia > #foot > #toes
        root > lowerback > upperback > thorax > lowerneck > upperneck > head
        thorax > #clavicle > #humerus > #radius > #wrist > #hand > #fingers
        #wrist > #thumb
        hips=root spine=lowerback chest=thorax neck=lowerneck head=head collar=#clavicle shoulder=#humerus
        elbow=#radius wrist=#wrist hand=#fingers hip=#femur knee=#tibia ankle=#foot toe=#toes""",
    "CMU as BVH for MotionBuilder": """Left Right
        Hips > L_HipJoint > LeftUpLeg > LeftLeg > LeftFoot > LeftToeBase
        Hips > R_HipJoint > RightUpLeg > RightLeg > RightFoot > RightToeBase
        Hips > LowerBack > Spine > Spine1 > Neck > Neck1 > Head
        Spine1 > #Shoulder > #Arm > #ForeArm > #Hand > #FingerBase > #HandIndex1
        #Hand > #Thumb
        hips=Hips spine=LowerBack chest=Spine1 neck=Neck head=Head collar=#Shoulder shoulder=#Arm elbow=#ForeArm
        wrist=#Hand hand=#FingerBase hip=#UpLeg knee=#Leg ankle=#Foot toe=#ToeBase""",
    "CMU as BVH for 3ds Max": """Left Right
        Hips > LHipJoint > LeftHip > LeftKnee > LeftAnkle > LeftToe
        Hips > RHipJoint > RightHip > RightKnee > RightAnkle > RightToe
        Hips > lowerback > Chest > Chest2 > lowerneck > Neck > Head
        Chest2 > #Collar > #Shoulder > #Elbow > #Wrist
        hips=Hips spine=lowerback chest=Chest2 neck=lowerneck head=Head collar=#Collar shoulder=#Shoulder elbow=#Elbow
        wrist=#Wrist hip=#Hip knee=#Knee ankle=#Ankle toe=#Toe""",
    "CMU as BVH for Daz, Poser": """l r
        hip > #Buttock > #Thigh > #Shin > #Foot > #Toe
        hip > abdomen > chest > neck > head > leftEye
        chest > #Collar > #Shldr > #ForeArm > #Hand > #Thumb1
        #Hand > #Mid1
        hips=hip spine=abdomen chest=chest neck=neck head=head collar=#Collar shoulder=#Shldr elbow=#ForeArm
        wrist=#Hand hand=#Mid1 hip=#Thigh knee=#Shin ankle=#Foot toe=#Toe""",
    "Mixamo": """Left Right
        mixamorig:Hips > mixamorig:#UpLeg > mixamorig:#Leg > mixamorig:#Foot > mixamorig:#ToeBase > mixamorig:#Toe_End
        mixamorig:Hips > mixamorig:Spine > mixamorig:Spine1 > mixamorig:Spine2 > mixamorig:Neck > mixamorig:Head
        mixamorig:Head > mixamorig:HeadTop_End
        mixamorig:Spine2 > mixamorig:#Shoulder > mixamorig:#Arm > mixamorig:#ForeArm > mixamorig:#Hand
        mixamorig:#Hand > mixamorig:#HandThumb1 > mixamorig:#HandThumb2
        mixamorig:#Hand > mixamorig:#HandMiddle1 > mixamorig:#HandMiddle2
        hips=mixamorig:Hips spine=mixamorig:Spine chest=mixamorig:Spine2 neck=mixamorig:Neck head=mixamorig:Head
        collar=mixamorig:#Shoulder shoulder=mixamorig:#Arm elbow=mixamorig:#ForeArm wrist=mixamorig:#Hand
        hand=mixamorig:#HandMiddle1 hip=mixamorig:#UpLeg knee=mixamorig:#Leg ankle=mixamorig:#Foot
        toe=mixamorig:#ToeBase""",
    "Mixamo without a colon": """Left Right
        mixamorigHips > mixamorig#UpLeg > mixamorig#Leg > mixamorig#Foot > mixamorig#ToeBase
        mixamorigHips > mixamorigSpine > mixamorigSpine1 > mixamorigSpine2 > mixamorigNeck > mixamorigHead
        mixamorigSpine2 > mixamorig#Shoulder > mixamorig#Arm > mixamorig#ForeArm > mixamorig#Hand
        hips=mixamorigHips spine=mixamorigSpine chest=mixamorigSpine2 neck=mixamorigNeck head=mixamorigHead
        collar=mixamorig#Shoulder shoulder=mixamorig#Arm elbow=mixamorig#ForeArm wrist=mixamorig#Hand
        hip=mixamorig#UpLeg knee=mixamorig#Leg ankle=mixamorig#Foot toe=mixamorig#ToeBase""",
    "LAFAN1": """Left Right
        Hips > #UpLeg > #Leg > #Foot > #Toe
        Hips > Spine > Spine1 > Spine2 > Neck > Head
        Spine2 > #Shoulder > #Arm > #ForeArm > #Hand
        hips=Hips spine=Spine chest=Spine2 neck=Neck head=Head collar=#Shoulder shoulder=#Arm elbow=#ForeArm wrist=#Hand
        hip=#UpLeg knee=#Leg ankle=#Foot toe=#Toe""",
    "Bandai-Namco": """L R
        joint_Root > Hips > Spine > Chest > Neck > Head
        Chest > Shoulder_# > UpperArm_# > LowerArm_# > Hand_#
        Hips > UpperLeg_# > LowerLeg_# > Foot_# > Toes_#
        hips=Hips spine=Spine chest=Chest neck=Neck head=Head collar=Shoulder_# shoulder=UpperArm_# elbow=LowerArm_#
        wrist=Hand_# hip=UpperLeg_# knee=LowerLeg_# ankle=Foot_# toe=Toes_#""",
    "SMPL": """left right
        pelvis > #_hip > #_knee > #_ankle > #_foot
        pelvis > spine1 > spine2 > spine3 > neck > head
        spine3 > #_collar > #_shoulder > #_elbow > #_wrist > #_hand
        hips=pelvis spine=spine1 chest=spine3 neck=neck head=head collar=#_collar shoulder=#_shoulder elbow=#_elbow
        wrist=#_wrist hand=#_hand hip=#_hip knee=#_knee ankle=#_ankle toe=#_foot""",
    "SMPL-X": """left right
        pelvis > #_hip > #_knee > #_ankle > #_foot
        pelvis > spine1 > spine2 > spine3 > neck > head > jaw
        head > #_eye_smplhf
        spine3 > #_collar > #_shoulder > #_elbow > #_wrist > #_middle1 > #_middle2
        #_wrist > #_index1
        hips=pelvis spine=spine1 chest=spine3 neck=neck head=head collar=#_collar shoulder=#_shoulder elbow=#_elbow
        wrist=#_wrist hand=#_middle1 hip=#_hip knee=#_knee ankle=#_ankle toe=#_foot""",
    "SMPL in Blender": """L R
        m_avg_root > m_avg_Pelvis > m_avg_#_Hip > m_avg_#_Knee > m_avg_#_Ankle > m_avg_#_Foot
        m_avg_Pelvis > m_avg_Spine1 > m_avg_Spine2 > m_avg_Spine3 > m_avg_Neck > m_avg_Head
        m_avg_Spine3 > m_avg_#_Collar > m_avg_#_Shoulder > m_avg_#_Elbow > m_avg_#_Wrist > m_avg_#_Hand
        hips=m_avg_Pelvis spine=m_avg_Spine1 chest=m_avg_Spine3 neck=m_avg_Neck head=m_avg_Head collar=m_avg_#_Collar
        shoulder=m_avg_#_Shoulder elbow=m_avg_#_Elbow wrist=m_avg_#_Wrist hand=m_avg_#_Hand hip=m_avg_#_Hip
        knee=m_avg_#_Knee ankle=m_avg_#_Ankle toe=m_avg_#_Foot""",
    "Xsens MVN as BVH": """Left Right
        Hips > Chest > Chest2 > Chest3 > Chest4 > Neck > Head
        Chest4 > #Collar > #Shoulder > #Elbow > #Wrist
        Hips > #Hip > #Knee > #Ankle > #Toe
        hips=Hips spine=Chest chest=Chest4 neck=Neck head=Head collar=#Collar shoulder=#Shoulder elbow=#Elbow
        wrist=#Wrist hip=#Hip knee=#Knee ankle=#Ankle toe=#Toe""",
    "Xsens MVNX": """Left Right
        Pelvis > L5 > L3 > T12 > T8 > Neck > Head
        T8 > #Shoulder > #UpperArm > #ForeArm > #Hand
        Pelvis > #UpperLeg > #LowerLeg > #Foot > #Toe
        hips=Pelvis spine=L5 chest=T8 neck=Neck head=Head collar=#Shoulder shoulder=#UpperArm elbow=#ForeArm wrist=#Hand
        hip=#UpperLeg knee=#LowerLeg ankle=#Foot toe=#Toe""",
    "OptiTrack Motive": """L R
        Hip > Ab > Chest > Neck > Head
        Chest > #Shoulder > #UArm > #FArm > #Hand
        Hip > #Thigh > #Shin > #Foot > #Toe
        hips=Hip spine=Ab chest=Chest neck=Neck head=Head collar=#Shoulder shoulder=#UArm elbow=#FArm wrist=#Hand
        hip=#Thigh knee=#Shin ankle=#Foot toe=#Toe""",
    "Vicon Plug-in Gait, short": """L R
        PEL > TRX > HED
        TRX > #CL > #HU > #RA > #HN
        PEL > #FE > #TI > #FO > #TO
        hips=PEL chest=TRX head=HED collar=#CL shoulder=#HU elbow=#RA wrist=#HN hip=#FE knee=#TI ankle=#FO toe=#TO""",
    "Vicon Nexus": """Left Right
        Pelvis > Thorax > Head
        Thorax > #Clavicle > #Humerus > #Radius > #Hand
        Pelvis > #Femur > #Tibia > #Foot > #Toes
        hips=Pelvis chest=Thorax head=Head collar=#Clavicle shoulder=#Humerus elbow=#Radius wrist=#Hand hip=#Femur
        knee=#Tibia ankle=#Foot toe=#Toes""",
    "OpenSim": """l r
        ground > pelvis > torso > head
        torso > humerus_# > ulna_# > radius_# > hand_#
        pelvis > femur_# > tibia_# > talus_# > calcn_# > toes_#
        hips=pelvis chest=torso head=head shoulder=humerus_# elbow=ulna_# wrist=hand_# hip=femur_# knee=tibia_#
        ankle=talus_# toe=toes_#""",
    "Perception Neuron": """Left Right
        Robot_Hips > Robot_#UpLeg > Robot_#Leg > Robot_#Foot
        Robot_Hips > Robot_Spine > Robot_Spine1 > Robot_Spine2 > Robot_Spine3 > Robot_Neck > Robot_Head
        Robot_Spine3 > Robot_#Shoulder > Robot_#Arm > Robot_#ForeArm > Robot_#Hand > Robot_#InHandMiddle
        Robot_#InHandMiddle > Robot_#HandMiddle1
        hips=Robot_Hips spine=Robot_Spine chest=Robot_Spine3 neck=Robot_Neck head=Robot_Head collar=Robot_#Shoulder
        shoulder=Robot_#Arm elbow=Robot_#ForeArm wrist=Robot_#Hand hand=Robot_#HandMiddle1 hip=Robot_#UpLeg
        knee=Robot_#Leg ankle=Robot_#Foot""",
    "Rokoko": """Left Right
        Hips > Spine1 > Spine2 > Spine3 > Spine4 > Neck > Head
        Spine4 > #Shoulder > #Arm > #ForeArm > #Hand > #Finger3Metacarpal
        Hips > #Thigh > #Shin > #Foot > #Toe
        hips=Hips spine=Spine1 chest=Spine4 neck=Neck head=Head collar=#Shoulder shoulder=#Arm elbow=#ForeArm
        wrist=#Hand hand=#Finger3Metacarpal hip=#Thigh knee=#Shin ankle=#Foot toe=#Toe""",
    "Biped": """L R
        Bip01 > Bip01 Pelvis > Bip01 Spine > Bip01 Spine1 > Bip01 Spine2 > Bip01 Neck > Bip01 Head > Bip01 HeadNub
        Bip01 Neck > Bip01 # Clavicle > Bip01 # UpperArm > Bip01 # Forearm > Bip01 # Hand > Bip01 # Finger2
        Bip01 # UpperArm > Bip01 # UpArmTwist
        Bip01 # Hand > Bip01 # Finger0
        Bip01 Pelvis > Bip01 # Thigh > Bip01 # Calf > Bip01 # Foot > Bip01 # Toe0 > Bip01 # Toe0Nub
        hips=Bip01 Pelvis|spine=Bip01 Spine|chest=Bip01 Spine2|neck=Bip01 Neck|head=Bip01 Head|collar=Bip01 # Clavicle|
        shoulder=Bip01 # UpperArm|elbow=Bip01 # Forearm|wrist=Bip01 # Hand|hand=Bip01 # Finger2|hip=Bip01 # Thigh|
        knee=Bip01 # Calf|ankle=Bip01 # Foot|toe=Bip01 # Toe0""",
    "Biped with legs on the spine": """L R
        Bip001 > Bip001 Pelvis > Bip001 Spine > Bip001 Spine1 > Bip001 Neck > Bip001 Head
        Bip001 Spine > Bip001 # Thigh > Bip001 # Calf > Bip001 # Foot > Bip001 # Toe0
        Bip001 Spine1 > Bip001 # Clavicle > Bip001 # UpperArm > Bip001 # Forearm > Bip001 # Hand
        hips=Bip001 Pelvis|chest=Bip001 Spine1|neck=Bip001 Neck|head=Bip001 Head|hip=Bip001 # Thigh|
        knee=Bip001 # Calf|shoulder=Bip001 # UpperArm""",
    "Valve": """L R
        ValveBiped.Bip01_Pelvis > ValveBiped.Bip01_Spine > ValveBiped.Bip01_Spine1 > ValveBiped.Bip01_Spine2
        ValveBiped.Bip01_Spine2 > ValveBiped.Bip01_Spine4 > ValveBiped.Bip01_Neck1 > ValveBiped.Bip01_Head1
        ValveBiped.Bip01_Spine4 > ValveBiped.Bip01_#_Clavicle > ValveBiped.Bip01_#_UpperArm
        ValveBiped.Bip01_#_UpperArm > ValveBiped.Bip01_#_Forearm > ValveBiped.Bip01_#_Hand
        ValveBiped.Bip01_Pelvis > ValveBiped.Bip01_#_Thigh > ValveBiped.Bip01_#_Calf > ValveBiped.Bip01_#_Foot
        ValveBiped.Bip01_#_Foot > ValveBiped.Bip01_#_Toe0
        hips=ValveBiped.Bip01_Pelvis spine=ValveBiped.Bip01_Spine chest=ValveBiped.Bip01_Spine4
        neck=ValveBiped.Bip01_Neck1 head=ValveBiped.Bip01_Head1 collar=ValveBiped.Bip01_#_Clavicle
        shoulder=ValveBiped.Bip01_#_UpperArm elbow=ValveBiped.Bip01_#_Forearm wrist=ValveBiped.Bip01_#_Hand
        hip=ValveBiped.Bip01_#_Thigh knee=ValveBiped.Bip01_#_Calf ankle=ValveBiped.Bip01_#_Foot
        toe=ValveBiped.Bip01_#_Toe0""",
    "Unreal": """l r
        root > pelvis > spine_01 > spine_02 > spine_03 > neck_01 > head
        spine_03 > clavicle_# > upperarm_# > lowerarm_# > hand_# > middle_01_# > middle_02_#
        upperarm_# > upperarm_twist_01_#
        lowerarm_# > lowerarm_twist_01_#
        pelvis > thigh_# > thigh_twist_01_#
        thigh_# > calf_# > calf_twist_01_#
        calf_# > foot_# > ball_#
        root > ik_foot_root > ik_foot_#
        root > ik_hand_root > ik_hand_gun > ik_hand_#
        hips=pelvis spine=spine_01 chest=spine_03 neck=neck_01 head=head collar=clavicle_# shoulder=upperarm_#
        elbow=lowerarm_# wrist=hand_# hand=middle_01_# hip=thigh_# knee=calf_# ankle=foot_# toe=ball_#""",
    "Unity": """Left Right
        Hips > Spine > Chest > UpperChest > Neck > Head > Jaw
        UpperChest > #Shoulder > #UpperArm > #LowerArm > #Hand > # Middle Proximal > # Middle Intermediate
        Hips > #UpperLeg > #LowerLeg > #Foot > #Toes
        hips=Hips|spine=Spine|chest=UpperChest|neck=Neck|head=Head|collar=#Shoulder|shoulder=#UpperArm|elbow=#LowerArm|
        wrist=#Hand|hand=# Middle Proximal|hip=#UpperLeg|knee=#LowerLeg|ankle=#Foot|toe=#Toes""",
    "Rigify": """L R
        spine > pelvis.#
        spine > spine.001 > spine.002 > spine.003 > spine.004 > spine.005 > spine.006 > face
        face > jaw
        face > nose
        spine.003 > shoulder.# > upper_arm.# > forearm.# > hand.# > palm.02.# > f_middle.01.#
        spine.003 > breast.#
        spine > thigh.# > shin.# > foot.# > toe.#
        foot.# > heel.02.#
        hips=spine spine=spine.001 chest=spine.003 neck=spine.004 collar=shoulder.# shoulder=upper_arm.#
        elbow=forearm.# wrist=hand.# hand=f_middle.01.# hip=thigh.# knee=shin.# ankle=foot.# toe=toe.#""",
    "Rigify's deforming bones": """L R
        root > DEF-spine > DEF-spine.001 > DEF-spine.002 > DEF-spine.003 > DEF-spine.004 > DEF-spine.006
        DEF-spine.003 > DEF-shoulder.# > DEF-upper_arm.# > DEF-upper_arm.#.001 > DEF-forearm.# > DEF-forearm.#.001
        DEF-forearm.#.001 > DEF-hand.# > DEF-f_middle.01.#
        DEF-spine > DEF-thigh.# > DEF-thigh.#.001 > DEF-shin.# > DEF-shin.#.001 > DEF-foot.# > DEF-toe.#
        hips=DEF-spine spine=DEF-spine.001 chest=DEF-spine.003 neck=DEF-spine.004 head=DEF-spine.006
        collar=DEF-shoulder.# shoulder=DEF-upper_arm.# elbow=DEF-forearm.# wrist=DEF-hand.# hip=DEF-thigh.#
        knee=DEF-shin.# ankle=DEF-foot.# toe=DEF-toe.#""",
    "Rigify's original bones with controls": """L R
        root > torso > ORG-spine > ORG-spine.001 > ORG-spine.002 > ORG-spine.003 > ORG-neck > ORG-head
        root > hand_ik.# > MCH-upper_arm_ik_target.#
        root > foot_ik.# > thigh_ik_target.#
        ORG-spine.003 > ORG-shoulder.# > upper_arm_fk.# > ORG-upper_arm.# > ORG-forearm.# > ORG-hand.#
        ORG-spine > ORG-thigh.# > ORG-shin.# > ORG-foot.# > ORG-toe.#
        hips=ORG-spine chest=ORG-spine.003 neck=ORG-neck head=ORG-head shoulder=ORG-upper_arm.# elbow=ORG-forearm.#
        wrist=ORG-hand.# hip=ORG-thigh.# knee=ORG-shin.# ankle=ORG-foot.# toe=ORG-toe.#""",
    "VRM of VRoid": """L R
        Root > J_Bip_C_Hips > J_Bip_C_Spine > J_Bip_C_Chest > J_Bip_C_UpperChest > J_Bip_C_Neck > J_Bip_C_Head
        J_Bip_C_Head > J_Sec_Hair1_01 > J_Sec_Hair2_01
        J_Bip_C_UpperChest > J_Bip_#_Shoulder > J_Bip_#_UpperArm > J_Bip_#_LowerArm > J_Bip_#_Hand > J_Bip_#_Middle1
        J_Bip_C_UpperChest > J_Sec_#_Bust1
        J_Bip_C_Hips > J_Bip_#_UpperLeg > J_Bip_#_LowerLeg > J_Bip_#_Foot > J_Bip_#_ToeBase
        hips=J_Bip_C_Hips spine=J_Bip_C_Spine chest=J_Bip_C_UpperChest neck=J_Bip_C_Neck head=J_Bip_C_Head
        collar=J_Bip_#_Shoulder shoulder=J_Bip_#_UpperArm elbow=J_Bip_#_LowerArm wrist=J_Bip_#_Hand
        hand=J_Bip_#_Middle1 hip=J_Bip_#_UpperLeg knee=J_Bip_#_LowerLeg ankle=J_Bip_#_Foot toe=J_Bip_#_ToeBase""",
    "MakeHuman": """L R
        root > spine05 > spine04 > spine03 > spine02 > spine01 > neck01 > neck02 > neck03 > head > jaw
        spine01 > clavicle.# > shoulder01.# > upperarm01.# > upperarm02.# > lowerarm01.# > lowerarm02.# > wrist.#
        wrist.# > metacarpal1.# > finger2-1.#
        root > pelvis.# > upperleg01.# > upperleg02.# > lowerleg01.# > lowerleg02.# > foot.# > toe1-1.# > toe1-2.#
        hips=root spine=spine05 chest=spine01 neck=neck01 head=head collar=clavicle.# shoulder=upperarm01.#
        elbow=lowerarm01.# wrist=wrist.# hip=upperleg01.# knee=lowerleg01.# ankle=foot.# toe=toe1-1.#""",
    "Daz Genesis 8": """l r
        hip > pelvis > #ThighBend > #ThighTwist > #Shin > #Foot > #Metatarsals > #Toe > #BigToe
        hip > abdomenLower > abdomenUpper > chestLower > chestUpper > neckLower > neckUpper > head
        chestUpper > #Collar > #ShldrBend > #ShldrTwist > #ForearmBend > #ForearmTwist > #Hand > #Carpal1 > #Mid1
        hips=pelvis spine=abdomenLower chest=chestUpper neck=neckLower head=head collar=#Collar shoulder=#ShldrBend
        elbow=#ForearmBend wrist=#Hand hand=#Mid1 hip=#ThighBend knee=#Shin ankle=#Foot toe=#Toe""",
    "MikuMikuDance": """左 右
        全ての親 > センター > グルーブ > 腰 > 下半身 > #足 > #ひざ > #足首 > #つま先
        腰 > 上半身 > 上半身2 > 首 > 頭 > 両目
        上半身2 > #肩P > #肩 > #腕 > #腕捩 > #ひじ > #手捩 > #手首 > #中指１ > #中指２
        #足 > #足D > #ひざD > #足首D
        全ての親 > #足ＩＫ > #つま先ＩＫ
        hips=下半身 spine=上半身 chest=上半身2 neck=首 head=頭 collar=#肩 shoulder=#腕 elbow=#ひじ wrist=#手首
        hand=#中指１ hip=#足 knee=#ひざ ankle=#足首 toe=#つま先""",
    "MikuMikuDance in Blender, simple": """L R
        センター > 下半身 > 足.# > ひざ.# > 足首.# > つま先.#
        センター > 上半身 > 首 > 頭
        上半身 > 肩.# > 腕.# > ひじ.# > 手首.#
        hips=下半身 chest=上半身 neck=首 head=頭 collar=肩.# shoulder=腕.# elbow=ひじ.# wrist=手首.# hip=足.#
        knee=ひざ.# ankle=足首.# toe=つま先.#""",
    "iClone": """L R
        CC_Base_BoneRoot > CC_Base_Hip > CC_Base_Pelvis > CC_Base_#_Thigh > CC_Base_#_Calf > CC_Base_#_Foot
        CC_Base_#_Foot > CC_Base_#_ToeBase > CC_Base_#_BigToe1
        CC_Base_#_Thigh > CC_Base_#_ThighTwist01
        CC_Base_#_Calf > CC_Base_#_KneeShareBone
        CC_Base_Hip > CC_Base_Waist > CC_Base_Spine01 > CC_Base_Spine02 > CC_Base_NeckTwist01 > CC_Base_NeckTwist02
        CC_Base_NeckTwist02 > CC_Base_Head > CC_Base_FacialBone
        CC_Base_Spine02 > CC_Base_#_Clavicle > CC_Base_#_Upperarm > CC_Base_#_Forearm > CC_Base_#_Hand
        CC_Base_#_Hand > CC_Base_#_Mid1
        CC_Base_#_Upperarm > CC_Base_#_UpperarmTwist01
        hips=CC_Base_Pelvis chest=CC_Base_Spine02 neck=CC_Base_NeckTwist01 head=CC_Base_Head collar=CC_Base_#_Clavicle
        shoulder=CC_Base_#_Upperarm elbow=CC_Base_#_Forearm wrist=CC_Base_#_Hand hand=CC_Base_#_Mid1
        hip=CC_Base_#_Thigh knee=CC_Base_#_Calf ankle=CC_Base_#_Foot toe=CC_Base_#_ToeBase""",
    "Kinect": """Left Right
        SpineBase > SpineMid > SpineShoulder > Neck > Head
        SpineShoulder > Shoulder# > Elbow# > Wrist# > Hand# > HandTip#
        Wrist# > Thumb#
        SpineBase > Hip# > Knee# > Ankle# > Foot#
        hips=SpineBase spine=SpineMid chest=SpineShoulder neck=Neck head=Head shoulder=Shoulder# elbow=Elbow#
        wrist=Wrist# hip=Hip# knee=Knee# ankle=Ankle# toe=Foot#""",
    "Kinect for Xbox 360": """Left Right
        HipCenter > Spine > ShoulderCenter > Head
        ShoulderCenter > Shoulder# > Elbow# > Wrist# > Hand#
        HipCenter > Hip# > Knee# > Ankle# > Foot#
        hips=HipCenter spine=Spine chest=ShoulderCenter head=Head shoulder=Shoulder# elbow=Elbow# wrist=Wrist#
        hand=Hand# hip=Hip# knee=Knee# ankle=Ankle# toe=Foot#""",
    "Azure Kinect": """LEFT RIGHT
        PELVIS > SPINE_NAVEL > SPINE_CHEST > NECK > HEAD
        SPINE_CHEST > CLAVICLE_# > SHOULDER_# > ELBOW_# > WRIST_# > HAND_#
        PELVIS > HIP_# > KNEE_# > ANKLE_# > FOOT_#
        hips=PELVIS spine=SPINE_NAVEL chest=SPINE_CHEST neck=NECK head=HEAD collar=CLAVICLE_# shoulder=SHOULDER_#
        elbow=ELBOW_# wrist=WRIST_# hand=HAND_# hip=HIP_# knee=KNEE_# ankle=ANKLE_# toe=FOOT_#""",
    "OpenPose": """L R
        MidHip > Torso > Neck > Head
        Torso > #Shoulder > #Elbow > #Wrist
        MidHip > #Hip > #Knee > #Ankle > #BigToe
        #Ankle > #Heel
        hips=MidHip chest=Torso neck=Neck head=Head shoulder=#Shoulder elbow=#Elbow wrist=#Wrist hip=#Hip knee=#Knee
        ankle=#Ankle toe=#BigToe""",
    "AdvancedSkeleton": """L R
        Root_M > Hip_# > Knee_# > Ankle_# > Toes_# > ToesEnd_#
        Root_M > Spine1_M > Chest_M > Neck_M > Head_M > Jaw_M
        Chest_M > Scapula_# > Shoulder_# > Elbow_# > Wrist_# > MiddleFinger1_#
        hips=Root_M spine=Spine1_M chest=Chest_M neck=Neck_M head=Head_M collar=Scapula_# shoulder=Shoulder_#
        elbow=Elbow_# wrist=Wrist_# hand=MiddleFinger1_# hip=Hip_# knee=Knee_# ankle=Ankle_# toe=Toes_#""",
    "ARKit": """left right
        root > hips_joint > #_upLeg_joint > #_leg_joint > #_foot_joint > #_toes_joint
        hips_joint > spine_1_joint > spine_2_joint > spine_7_joint > neck_1_joint > neck_2_joint > head_joint
        spine_7_joint > #_shoulder_1_joint > #_arm_joint > #_forearm_joint > #_hand_joint > #_handMid_1_joint
        hips=hips_joint spine=spine_1_joint chest=spine_7_joint neck=neck_1_joint head=head_joint
        collar=#_shoulder_1_joint shoulder=#_arm_joint elbow=#_forearm_joint wrist=#_hand_joint hip=#_upLeg_joint
        knee=#_leg_joint ankle=#_foot_joint toe=#_toes_joint""",
    "roll joints": """Left Right
        Hips > #UpLeg > #UpLegRoll > #Leg > #LegRoll > #Foot > #ToeBase
        Hips > Spine > Neck > Head
        Spine > #Shoulder > #Arm > #ArmRoll > #ForeArm > #ForeArmRoll > #Hand
        hips=Hips chest=Spine neck=Neck head=Head collar=#Shoulder shoulder=#Arm elbow=#ForeArm wrist=#Hand hip=#UpLeg
        knee=#Leg ankle=#Foot toe=#ToeBase""",
    "Unitree G1, joints": """left right
        pelvis > #_hip_pitch_joint > #_hip_roll_joint > #_hip_yaw_joint > #_knee_joint > #_ankle_pitch_joint
        #_ankle_pitch_joint > #_ankle_roll_joint > #_toe
        #_ankle_roll_joint > #_heel
        pelvis > =waist_yaw_joint > waist_roll_joint > =waist_pitch_joint > head
        waist_pitch_joint > #_shoulder_pitch_joint > #_shoulder_roll_joint > #_shoulder_yaw_joint > #_elbow_joint
        #_elbow_joint > #_wrist_roll_joint > #_wrist_pitch_joint > #_wrist_yaw_joint > #_hand
        hips=pelvis spine=waist_yaw_joint chest=waist_pitch_joint shoulder=#_shoulder_roll_joint elbow=#_elbow_joint
        wrist=#_wrist_pitch_joint hand=#_hand hip=#_hip_roll_joint knee=#_knee_joint ankle=#_ankle_pitch_joint
        toe=#_toe head=head""",
    "Unitree G1 with 23 joints, links": """left right
        pelvis > #_hip_pitch_link > #_hip_roll_link > #_hip_yaw_link > #_knee_link > #_ankle_pitch_link
        #_ankle_pitch_link > #_ankle_roll_link
        pelvis > torso_link > #_shoulder_pitch_link > #_shoulder_roll_link > #_shoulder_yaw_link > #_elbow_link
        #_elbow_link > #_wrist_roll_rubber_hand
        hips=pelvis chest=torso_link shoulder=#_shoulder_roll_link elbow=#_elbow_link wrist=#_wrist_roll_rubber_hand
        hip=#_hip_roll_link knee=#_knee_link ankle=#_ankle_pitch_link""",
    "Unitree H1": """left right
        pelvis > #_hip_yaw_joint > #_hip_roll_joint > #_hip_pitch_joint > #_knee_joint > #_ankle_joint
        pelvis > torso_joint > #_shoulder_pitch_joint > #_shoulder_roll_joint > #_shoulder_yaw_joint > #_elbow_joint
        #_elbow_joint > #_elbow_joint_end
        hips=pelvis chest=torso_joint shoulder=#_shoulder_roll_joint elbow=#_elbow_joint wrist=#_elbow_joint_end
        hip=#_hip_roll_joint knee=#_knee_joint ankle=#_ankle_joint""",
    "HRP-4C": """L R
        BODY > CHEST_P > =CHEST_R > =CHEST_Y > NECK_Y > =NECK_R > =NECK_P
        CHEST_Y > #_SHOULDER_P > =#_SHOULDER_R > =#_SHOULDER_Y > #_ELBOW_P > =#_WRIST_Y > #_WRIST_R > #_HAND_J0
        BODY > #_HIP_Y > =#_HIP_R > =#_HIP_P > #_KNEE_P > #_ANKLE_P > =#_ANKLE_R
        hips=BODY chest=CHEST_Y neck=NECK_Y shoulder=#_SHOULDER_R elbow=#_ELBOW_P wrist=#_WRIST_R hip=#_HIP_R
        knee=#_KNEE_P ankle=#_ANKLE_P hand=#_HAND_J0""",
    "NAO": """L R
        torso > HeadYaw > =HeadPitch
        torso > #ShoulderPitch > =#ShoulderRoll > #ElbowYaw > =#ElbowRoll > #WristYaw > #Hand
        torso > #HipYawPitch > =#HipRoll > =#HipPitch > #KneePitch > #AnklePitch > =#AnkleRoll
        shoulder=#ShoulderPitch elbow=#ElbowYaw wrist=#WristYaw hip=#HipRoll knee=#KneePitch ankle=#AnklePitch""",
    "leg, knee, ankle": """L R
        center > lower body > leg_# > knee_# > ankle_# > toe_#
        center > upper body > neck > head
        upper body > shoulder_# > arm_# > arm twist_# > elbow_# > wrist_#
        hips=lower body|chest=upper body|collar=shoulder_#|shoulder=arm_#|elbow=elbow_#|wrist=wrist_#|hip=leg_#|
        knee=knee_#|ankle=ankle_#|toe=toe_#""",
}


def skeleton_of(naming: str) -> tuple[Skeleton, dict[str, str]]:
    """The joints of a naming and what plays each role."""
    marks, *lines = [line.strip() for line in NAMINGS[naming].splitlines()]
    chains = [line for line in lines if ">" in line]
    told = " ".join(line for line in lines if ">" not in line)
    expected: dict[str, str] = {}
    for pair in told.split("|" if "|" in told else " "):
        role, _, joint = pair.strip().partition("=")
        for side, mark in zip(("left_", "right_"), marks.split(), strict=True):
            expected[side + role if "#" in joint else role] = joint.replace("#", mark)
    tree: dict[str, tuple[str, float]] = {}
    for chain in chains:
        for mark in marks.split() if "#" in chain else [""]:
            line = [name.strip().replace("#", mark) for name in chain.split(">")]
            tree.setdefault(line[0].removeprefix("="), ("", 0.0))
            for above, name in itertools.pairwise(line):
                tree[name.removeprefix("=")] = (above.removeprefix("="), 0.0 if name.startswith("=") else 0.1)
    rows = depth_first([(name, parent, np.full(3, length)) for name, (parent, length) in tree.items()])
    names = [name for name, _, _ in rows]
    parents = [names.index(parent) if parent else -1 for _, parent, _ in rows]
    return Skeleton(names, parents, [offset for _, _, offset in rows]), expected


@pytest.mark.parametrize("naming", NAMINGS)
def test_the_roles_of_a_naming(naming: str):
    skeleton, expected = skeleton_of(naming)
    found = {role: skeleton.names[joint] for role, joint in find_roles(skeleton).joints.items()}
    assert {role: found.get(role) for role in expected} == expected
    assert len(set(found.values())) == len(found)
    assert "guess" not in find_roles(skeleton).how.values()


@pytest.mark.parametrize("naming", sorted(set(NAMINGS) - {"NAO"}))
def test_every_naming_gives_a_body(naming: str):
    body = Body.of(skeleton_of(naming)[0])
    assert set(NEEDED) <= set(body.joints)
    assert tuple(body.joints) == tuple(role for role in ROLES if role in body)


def nameless(skeleton: Skeleton, up: str = "z", scale: float = 1.0) -> Skeleton:
    """The skeleton without names, in a file's own axes and unit."""
    names = [f"joint{n}" for n in range(len(skeleton))]
    return Skeleton(names, skeleton.parents, up_vectors(skeleton.offsets, up) * scale, skeleton.end_sites)


@pytest.mark.parametrize("up", ["x", "y", "z"])
@pytest.mark.parametrize("arms_down", [False, True])
def test_without_names_a_standing_body_is_guessed_whatever_axis_is_up(up: str, arms_down: bool):
    body = person(arms_down=arms_down)
    found = find_roles(nameless(body, up, 100))
    assert dict(found.joints) == dict(find_roles(body).joints)
    assert set(found.how.values()) == {"guess"}


def test_left_is_where_the_toes_say():
    body = person()
    behind = np.where(np.isin(np.arange(len(body)), [body.index("LeftToe"), body.index("RightToe")])[:, None], -1, 1)
    found = find_roles(nameless(Skeleton(body.names, body.parents, body.offsets * [1, 1, 1] * behind ** [0, 1, 0])))
    assert body.names[found.joints["left_knee"]] == "RightKnee"
    assert body.names[found.joints["left_wrist"]] == "RightWrist"


def test_words_for_the_sides_are_believed_before_toes():
    body = person()
    names = [n.replace("Left", "a_left_").replace("Right", "a_right_") for n in body.names]
    words = {"Collar": "k", "Shoulder": "o", "Elbow": "e", "Wrist_end": "f", "Wrist": "z", "Hip": "h", "Knee": "g"}
    words |= {
        "Ankle": "s",
        "Toe_end": "u",
        "Toe": "v",
        "Hips": "x",
        "Spine": "y",
        "Chest": "w",
        "Neck": "q",
        "Head": "j",
    }
    for word, other in words.items():
        names = [name.replace(word, other) for name in names]
    no_toes = body.offsets * np.where(np.char.find(np.array(body.names), "Toe") >= 0, 1e-3, 1.0)[:, None]
    found = find_roles(Skeleton(names, body.parents, no_toes, body.end_sites))
    assert {found.how[role] for role in NEEDED} == {"guess"}
    assert body.names[found.joints["left_knee"]] == "LeftKnee"


def test_with_words_for_the_sides_the_rest_pose_need_not_stand():
    lying = along_local_axes(swinging(person())).skeleton
    sides = ["_L" * name.startswith("Left") + "_R" * name.startswith("Right") for name in lying.names]
    strange = lying.replace(names=[f"q{chr(97 + n)}{side}" for n, side in enumerate(sides)])
    assert dict(find_roles(strange).joints) == dict(find_roles(lying).joints)
    assert {find_roles(strange).how[role] for role in NEEDED} == {"guess"}


@pytest.mark.parametrize("spoiled", ["toes", "rope", "lying bones", "one leg longer", "point"])
def test_nothing_is_guessed_of_what_does_not_stand_as_a_body(spoiled: str):
    body = person()
    offsets = np.array(body.offsets)
    if spoiled == "toes":
        offsets[[body.index(f"{side}Toe") for side in ("Left", "Right")], 1] = 0
        offsets[[body.index(f"{side}Toe_end") for side in ("Left", "Right")], 1] = 0
    elif spoiled == "one leg longer":
        offsets[body.index("LeftKnee")] *= 1.5
    elif spoiled == "point":
        offsets[:] = 0
    strange = nameless(Skeleton(body.names, body.parents, offsets, body.end_sites))
    if spoiled == "lying bones":
        strange = nameless(along_local_axes(swinging(body)).skeleton)
    elif spoiled == "rope":
        strange = Skeleton([f"j{n}" for n in range(30)], range(-1, 29), np.full((30, 3), 0.1))
    assert not set(find_roles(strange).joints) - {"hips"}
    with pytest.raises(BodyError, match="no joint found for"):
        Body.of(strange)


@pytest.mark.data
@pytest.mark.parametrize("name", ["cmu/05_01.amc", "cmu/01_01.bvh", "cmu/131_01.bvh"])
def test_real_bodies_are_guessed_as_their_names_say(data, name):
    skeleton = read_motion(data / name, fps=120).skeleton
    by_name, guessed = find_roles(skeleton).joints, find_roles(nameless(skeleton)).joints
    assert {role for role in by_name if by_name[role] != guessed.get(role)} <= {"left_hand", "right_hand"}


def test_where_two_joints_of_a_limb_are_known_the_tree_tells_the_third():
    for unknown in ("Knee", "Elbow", "Wrist", "Ankle"):
        body = person()
        strange = body.replace(names=[name.replace(unknown, "X") for name in body.names])
        found = find_roles(strange)
        role = f"left_{unknown.lower()}"
        assert found.how[role] == "tree"
        assert strange.names[found.joints[role]] == "LeftX"
        assert dict(found.joints) == dict(find_roles(body).joints)


def test_a_joint_on_another_branch_plays_no_role_of_the_limb():
    body = person()
    extra = ("Left_Knee", "LeftElbow1")  # on the head: the names are right, the places are not
    parents = [*body.parents.tolist(), body.index("Head"), body.index("Head")]
    names = [name.replace("LeftKnee", "LeftX") for name in body.names]
    found = find_roles(Skeleton([*names, *extra], parents, [*body.offsets.tolist(), [0, 0, 0.1], [0, 0, 0.1]]))
    assert found.joints["left_knee"] == body.index("LeftKnee")
    assert found.joints["left_elbow"] == body.index("LeftElbow")


def test_the_middle_of_a_robots_hip_is_nearest_to_its_axes():
    rest = G1.skeleton.rest_positions
    at = {name: rest[G1.skeleton.index(f"left_hip_{name}_joint")] for name in ("pitch", "roll", "yaw")}
    # pitch turns about a line along Y, roll along X, yaw along Z: the point nearest to all three, by least squares
    square = [np.diag([1.0, 0, 1]), np.diag([0.0, 1, 1]), np.diag([1.0, 1, 0])]
    centre = np.linalg.solve(sum(square), sum(s @ p for s, p in zip(square, at.values(), strict=True)))
    away = {name: np.linalg.norm(p - centre) for name, p in at.items()}
    body = Body.of(G1.skeleton)
    assert G1.skeleton.names[body["left_hip"]] == f"left_hip_{min(away, key=away.__getitem__)}_joint"
    assert G1.skeleton.names[body.turning("left_hip")] == "left_hip_yaw_joint"
    assert body.turning("hips") == body["hips"]


def test_told_roles_hold_and_the_rest_is_found_around_them():
    body = person()
    told = Body.of(body.with_roles({"left_wrist": "LeftWrist_end", "head": "Head_end"}))
    assert told.skeleton.names[told["left_wrist"]] == "LeftWrist_end"
    assert told.skeleton.names[told["head"]] == "Head_end"
    assert told.how["left_wrist"] == told.how["head"] == "told"
    assert told["left_elbow"] == body.index("LeftElbow")
    assert "left_hand" not in told
    strange = body.replace(names=[name.replace("Wrist", "W").replace("Elbow", "E") for name in body.names])
    with pytest.raises(BodyError, match="left_wrist"):
        Body.of(Skeleton(strange.names, body.parents, body.offsets * 0))
    roles = {f"{side.lower()}_{role}": f"{side}{word}" for side in ("Left", "Right") for role, word in
             (("elbow", "E"), ("wrist", "W"))}  # fmt: skip
    assert dict(Body.of(strange.with_roles(roles)).joints) == dict(find_roles(body).joints)


def test_told_roles_that_make_no_limb_are_refused():
    with pytest.raises(BodyError, match=r"left_knee is LeftHip, which is not below left_hip, LeftKnee"):
        Body.of(person().with_roles({"left_hip": "LeftKnee", "left_knee": "LeftHip"}))
    with pytest.raises(BodyError, match=r"left_ankle is RightAnkle, which is not below left_knee"):
        Body.of(person().with_roles({"left_ankle": "RightAnkle", "left_knee": "LeftKnee"}))


def test_the_report_tells_every_role_and_what_comes_near():
    body = person()
    found = {row.role: row for row in role_report(body)}
    assert tuple(found) == ROLES
    assert (found["left_hand"].joint, found["left_hand"].how) == ("LeftWrist_end", "tree")
    assert found["left_wrist"].needed
    assert not found["left_hand"].needed
    names = [name.replace("LeftWrist", "LeftWrst").replace("LeftElbow", "LeftElbo") for name in body.names]
    missing = {row.role: row for row in role_report(Skeleton(names, body.parents, body.offsets * 0))}["left_wrist"]
    assert missing[:2] == ("left_wrist", None)
    assert missing.near[0] == "LeftWrst"


def test_the_error_names_what_comes_near_and_how_to_tell_it():
    body = person()
    names = [name.replace("LeftWrist", "LeftWrst").replace("LeftElbow", "LeftElbo") for name in body.names]
    with pytest.raises(BodyError) as caught:
        Body.of(Skeleton(names, body.parents, body.offsets * 0))
    assert "left_wrist may be LeftWrst" in str(caught.value)
    assert '[joints] and lines like left_elbow = "joint"' in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "name", ["L_Twist_Thigh", "LeftForeArmRoll", "thigh_ik.L", "lowerarm_twist_01_l", "左手捩", "左足ＩＫ"]
)
def test_helpers_play_no_role(name: str):
    assert parts_of([name]) == [None]


@pytest.mark.parametrize(
    "name", ["", ":", "|||", "左", "l", "_", "9" * 10000, "L" * 100000, "joint", "\ud800", "ﷺ" * 300]
)
def test_no_name_is_too_strange(name: str):
    assert len(parts_of([name, "x", name + "y"])) == 3
    find_roles(Skeleton(["root", "a" + name], [-1, 0], np.zeros((2, 3))))


def deep(count: int) -> Skeleton:
    return Skeleton([f"j{n}" for n in range(count)], range(-1, count - 1), np.full((count, 3), 0.01))


def bushy(count: int) -> Skeleton:
    names = [f"{side} hand {n}" for n in range(count // 2) for side in ("left", "right")]
    return Skeleton(["hips", *names], [-1, *([0] * len(names))], np.full((len(names) + 1, 3), 0.1))


@pytest.mark.parametrize(
    "skeleton", [deep(3000), bushy(3000), nameless(bushy(3000))], ids=["deep", "bushy", "nameless"]
)
def test_large_skeletons_take_no_time(skeleton: Skeleton):
    start = time.process_time()
    with pytest.raises(BodyError) as caught:
        Body.of(skeleton)
    assert time.process_time() - start < 1.0
    assert len(str(caught.value)) < 4000


def test_equal_skeletons_share_the_answer():
    assert find_roles(person()) is find_roles(person())
    assert find_roles(person()) is not find_roles(person().with_roles({"head": "Head_end"}))


def test_a_hip_whose_last_axis_swings_the_leg_is_turned_by_it():
    body = Body.of(skeleton_of("Unitree H1")[0])
    names = body.skeleton.names
    assert (names[body["left_hip"]], names[body.turning("left_hip")]) == ("left_hip_roll_joint", "left_hip_pitch_joint")


WORDS = sorted({word for role in ROLES for word in usual_names(role)})
NAMES = st.builds(
    "".join,
    st.tuples(
        st.sampled_from(["", "l", "r", "left", "Right", "L_", "左", "x"]),
        st.sampled_from(WORDS),
        st.sampled_from(["", "1", "_twist", "_pitch", "_yaw", "_joint", ".L"]),
    ),
)


@st.composite
def any_skeletons(draw: st.DrawFn) -> Skeleton:
    names = draw(st.lists(NAMES, min_size=1, max_size=40, unique=True))
    parents = [-1, *(draw(st.integers(max(0, n - 3), n - 1)) for n in range(1, len(names)))]
    scale = draw(st.sampled_from([0.0, 1e-300, 1.0, 1e160, 1e307]))
    return Skeleton(names, parents, np.array([[n % 2, n % 3 - 1, 0.5] for n in range(len(names))]) * scale)


@given(any_skeletons())
@settings(deadline=None)
@pytest.mark.filterwarnings("error")
def test_a_limb_runs_down_and_no_joint_plays_two_roles(skeleton: Skeleton):
    joints, tree = find_roles(skeleton).joints, Tree.of(skeleton)
    assert len(set(joints.values())) == len(joints)
    for limb in LIMBS:
        for side in ("left", "right"):
            line = [joints[role] for role in limb_roles(limb, side) if role in joints]
            assert all(tree.above(a, b) for a, b in itertools.pairwise(line))
